const ALL=[-1/0,1/0];

const span=n=>n.length?n:[n,n];

function side(n){const[s,t]=span(n);return s>0?1:t<0?-1:0}

function out(u,N,b=Number.EPSILON){return(u-=Math.abs(u)*b+Number.MIN_VALUE)<=(N+=Math.abs(N)*b+Number.MIN_VALUE)?[u,N]:[-1/0,1/0]}

function plus(t,n){let e=t,l=t,u=n,g=n;return t.length&&(e=t[0],l=t[1]),n.length&&(u=n[0],g=n[1]),out(e+u,l+g)}

function times(t,n){let e=t,h=t,a=n,i=n;t.length&&(e=t[0],h=t[1]),n.length&&(a=n[0],i=n[1]);const l=e*a||0,m=e*i||0,o=h*a||0,u=h*i||0;return out(Math.min(l,m,o,u),Math.max(l,m,o,u))}

function power(t,a){const[u,o]=span(t),n=u**Math.abs(a),h=o**Math.abs(a),[m,r]=a%2||u>0||o<0?out(Math.min(n,h),Math.max(n,h),4*Number.EPSILON):[0,out(n,Math.max(n,h),4*Number.EPSILON)[1]];return a>0?[m,r]:m>0||r<0?out(1/r,1/m):0===m?out(1/r,1/0):ALL}

function rising(u,n){return n.length?out(u(n[0]),u(n[1]),4*Number.EPSILON):out(u(n),u(n),4*Number.EPSILON)}

function cosine(a){const[t,h]=span(a),M=Math.ceil(t/Math.PI-1e-9),e=Math.floor(h/Math.PI+1e-9);if(!(e-M<1&&Math.abs(t)+Math.abs(h)<1e6))return[-1,1];const[n,s]=[Math.cos(t),Math.cos(h)],o=M===e&&1-2*Math.abs(M%2);return[-1===o?-1:Math.min(n,s)-4*Number.EPSILON,1===o?1:Math.max(n,s)+4*Number.EPSILON]}

function sums(t,n){const e=[],o=[],l=[];let r=0;for(let u=0;u<t.length;u++){if(!t[u])continue;const a=n(u);for(let t=0;t<a.length;t++){let n=a[t],u=n;n.length&&(u=n[1],n=n[0]),r?(e[t]+=n,o[t]+=u,l[t]+=Math.max(-n,u)):(e[t]=n,o[t]=u,l[t]=Math.max(-n,u))}r+=1}return e.map((t,n)=>{const u=r*Number.EPSILON*l[n];return out(e[n]-u,o[n]+u)})}

function isolate(s,e,n,t,i){const o=(n,t)=>{const[i,o]=s.enclose(e,[n,t]);if(side(i)||side(o))return[side(i),side(o)];const u=(n+t)/2,[l]=s.enclose(e,[u,u]);return[side(plus(l,times(o,plus([n,t],-u)))),0]},u=[],l=[];let r=2e3,c=n,f=0,[d,p]=[n,t].map((s,e)=>o(s,s)[0]||Math.sign(i[e]));const a=(s,e,n)=>{const[t,i]=o(s,e),l=(s+e)/2;t||i||!n||--r<0?u.push([s,e,t,i]):(a(s,l,n-1),a(l,e,n-1))};n<t&&a(n,t,48);for(const[s,e,n,i]of[...u,[t,t,p,0]])if(!n&&i&&f*i>=0)f=i;else{if(!n&&s<e)return[null,s,e];if(s>c?!(d*n):d*n<0)return[null,c,s];d*n<0&&l.push([c,s,n]),[c,d,f]=[e,n,0]}return l}
